C     Modified Cam clay: backward Euler in p, q and the preconsolidation
C     pressure pc, the shear modulus that of the start.  PROPS: kappa,
C     lambda, M, nu; STATEV: void ratio and pc, first values from the
C     deck; it starts from a compressive stress.  Tangent by differences.
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,RPL,DDSDDT,
     1 DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,
     2 CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     3 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),STATEV(NSTATV),DDSDDE(NTENS,NTENS),
     1 DDSDDT(NTENS),DRPLDE(NTENS),STRAN(NTENS),DSTRAN(NTENS),TIME(2),
     2 PREDEF(1),DPRED(1),PROPS(NPROPS),COORDS(3),DROT(3,3),
     3 DFGRD0(3,3),DFGRD1(3,3)
      DIMENSION S0(6),SN(6),DE(6),SP(6),SM(6),S1(6)
      XK=PROPS(1)
      XL=PROPS(2)
      XM=PROPS(3)
      XNU=PROPS(4)
      IF (NTENS.EQ.3) THEN
        WRITE(7,*) 'plane stress is not for this routine'
        CALL XIT
      END IF
      DO I=1,NTENS
        S0(I)=STRESS(I)
        DE(I)=DSTRAN(I)
      END DO
      CALL SINV(STRESS,P0,Q0,NDI,NSHR)
      IF (P0.GE.0.D0) THEN
        WRITE(6,*) 'MCC: mean stress is not compressive in element',
     1   NOEL,NPT,P0
        CALL XIT
      END IF
      VOID0=STATEV(1)
      PC0=STATEV(2)
      CALL MCCINT(S0,DE,VOID0,PC0,XK,XL,XM,XNU,NTENS,NDI,S1,PC1,IFAIL)
      IF (IFAIL.NE.0) THEN
        WRITE(7,*) 'no convergence in element',NOEL
        PNEWDT=0.25D0
        RETURN
      END IF
      H=1.D-7
      DO J=1,NTENS
        DE(J)=DSTRAN(J)+H
        CALL MCCINT(S0,DE,VOID0,PC0,XK,XL,XM,XNU,NTENS,NDI,SP,PX,IFAIL)
        DE(J)=DSTRAN(J)-H
        CALL MCCINT(S0,DE,VOID0,PC0,XK,XL,XM,XNU,NTENS,NDI,SM,PX,IFAIL)
        DE(J)=DSTRAN(J)
        DO I=1,NTENS
          DDSDDE(I,J)=(SP(I)-SM(I))/(2.D0*H)
        END DO
      END DO
      EV=0.D0
      DO I=1,NDI
        EV=EV+DSTRAN(I)
      END DO
      DO I=1,NTENS
        STRESS(I)=S1(I)
      END DO
      STATEV(1)=(1.D0+VOID0)*EXP(EV)-1.D0
      STATEV(2)=PC1
      RETURN
      END
      SUBROUTINE MCCINT(S0,DE,E0,PC0,XK,XL,XM,XNU,NTENS,NDI,S1,PC,IFAIL)
      IMPLICIT REAL*8(A-H,O-Z)
      DIMENSION S0(6),DE(6),S1(6),S(6)
      IFAIL=0
      EV=0.D0
      P0=0.D0
      DO I=1,NDI
        EV=EV-DE(I)
        P0=P0-S0(I)/3.D0
      END DO
      V0=1.D0+E0
      XKS=P0*V0/XK
      G=1.5D0*XKS*(1.D0-2.D0*XNU)/(1.D0+XNU)
C     Trial; K = V0 P/XK is integrated exactly.
      PT=P0*EXP(V0/XK*EV)
      QT2=0.D0
      DO I=1,NTENS
        IF (I.LE.NDI) THEN
          S(I)=S0(I)+P0+2.D0*G*(DE(I)+EV/3.D0)
          QT2=QT2+1.5D0*S(I)**2
        ELSE
          S(I)=S0(I)+G*DE(I)
          QT2=QT2+3.D0*S(I)**2
        END IF
      END DO
      QT=SQRT(QT2)
      PC=PC0
      P=PT
      FAC=1.D0
      F=QT2/XM**2+PT*(PT-PC0)
      IF (F.GT.1.D-10*PC0*PC0) THEN
        CALL SOLVE(P0,V0,EV,QT,G,PC0,XK,XL,XM,P,PC,Q,IFAIL)
        IF (QT.GT.0.D0) FAC=Q/QT
      END IF
      DO I=1,NTENS
        S1(I)=FAC*S(I)
        IF (I.LE.NDI) S1(I)=S1(I)-P
      END DO
      RETURN
      END
C     Unknowns: plastic volume EVP and multiplier DL.
      SUBROUTINE SOLVE(P0,V0,EV,QT,G,PC0,XK,XL,XM,P,PC,Q,IFAIL)
      IMPLICIT REAL*8(A-H,O-Z)
      DIMENSION R(2),A(2,2),X(2),RR(2)
      IFAIL=1
      X(1)=0.D0
      X(2)=0.D0
      DO IT=1,60
        CALL RES(X,R,P0,V0,EV,QT,G,PC0,XK,XL,XM,P,PC,Q)
        IF (ABS(R(1)).LT.1.D-13.AND.ABS(R(2)).LT.1.D-12) THEN
          IFAIL=0
          RETURN
        END IF
        DO J=1,2
          H=1.D-7*MAX(ABS(X(J)),1.D-5)
          XS=X(J)
          X(J)=XS+H
          CALL RES(X,RR,P0,V0,EV,QT,G,PC0,XK,XL,XM,P,PC,Q)
          X(J)=XS
          A(1,J)=(RR(1)-R(1))/H
          A(2,J)=(RR(2)-R(2))/H
        END DO
        DET=A(1,1)*A(2,2)-A(1,2)*A(2,1)
        X(1)=X(1)-( A(2,2)*R(1)-A(1,2)*R(2))/DET
        X(2)=X(2)-(-A(2,1)*R(1)+A(1,1)*R(2))/DET
      END DO
      RETURN
      END
      SUBROUTINE RES(X,R,P0,V0,EV,QT,G,PC0,XK,XL,XM,P,PC,Q)
      IMPLICIT REAL*8(A-H,O-Z)
      DIMENSION R(2),X(2)
C     X(2) = DL*PC0
      P=P0*EXP(V0/XK*(EV-X(1)))
      PC=PC0*EXP(V0/(XL-XK)*X(1))
      DL=X(2)/PC0
      Q=QT/(1.D0+6.D0*G*DL/XM**2)
      R(1)=X(1)-DL*(2.D0*P-PC)
      R(2)=(Q**2/XM**2+P*(P-PC))/PC0**2
      RETURN
      END
